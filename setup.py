"""Map the top-level language folders into the import package; sees a new language folder without being edited."""

from pathlib import Path

from setuptools import find_packages, setup

ROOMS = {"rpl": "rpl", "rpl.dialects": "dialects", "rpl.postprocessors": "postprocessors", "rpl.grammars": "grammars"}
packages = []
for name, folder in ROOMS.items():
    packages += [name, *(f"{name}.{inner}" for inner in find_packages(str(Path(folder))))]
DATA = ["*.lark", "*.toml", "*.j2", "*.css", "*.js", "*.rpl", "*.src", "*.mod", "*.dat", "*.script", "*.v2", "py.typed"]

setup(packages=packages, package_dir=ROOMS, package_data={"": DATA})
