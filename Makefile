# `make demo` and `make test` set up all they need in .venv; a second run needs no network.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
ROBOT ?= kuka_kr6r900sixx
TO_ROBOT ?= abb_irb1200_5_90
WORKERS ?= 2

.PHONY: demo test test-long test-clients lint types clean

# The stamps say which set of packages the environment has; pyproject.toml decides when that is out of date.
$(VENV)/.demo-ready: pyproject.toml setup.py
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	test -f $(VENV)/.test-ready || $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[kinematics]'
	touch $@

$(VENV)/.test-ready: pyproject.toml setup.py
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[cell,step,view,plot,ftp,ssh,rws,parquet,dask,test,dev]' 'setuptools>=75'
	touch $@

demo: $(VENV)/.demo-ready
	@echo "== A KUKA palletiser, checked:"
	$(BIN)/rpl check samples/krl/palletiser
	@echo "== Run on the emulated KUKA arm:"
	$(BIN)/rpl run samples/krl/palletiser --robot $(ROBOT)
	@echo "== Written for an ABB arm, and compared with the source by running both:"
	rm -rf demo-out
	$(BIN)/rpl translate samples/krl/palletiser --to rapid --robot $(ROBOT) --to-robot $(TO_ROBOT) -o demo-out --prove \
		|| test $$? -eq 3  # 3: there is something to look at, and the first line says what
	@echo "== The ABB program is in demo-out:"
	@ls -l demo-out

test: $(VENV)/.test-ready
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal -m "not slow and not clients"

# The long generated runs; as many minutes as you have.
test-long: $(VENV)/.test-ready
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal -m slow

# Other people's clients against the virtual controllers; their packages are installed when they are not there.
test-clients: $(VENV)/.test-ready
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal -m clients -rs

lint: $(VENV)/.test-ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.test-ready
	$(BIN)/mypy
	$(BIN)/mypy dialects postprocessors

clean:
	rm -rf demo-out build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis $(VENV)/.demo-ready $(VENV)/.test-ready
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
