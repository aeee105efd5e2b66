"""What a percent of a joint move counts as in mm, for a language that says speeds and corners of joint moves in mm or
for one that says them in percent. Both are approximations that are reported where they are used.
"""

# A joint move's speed in percent as a tool speed: 100 % is the largest programmable tool speed of the target.
MM_S_PER_PERCENT = 50.0
# A joint blend in percent (of 90 degrees on KUKA) as a zone radius; zones are capped at half the move like the blend.
ZONE_MM_PER_PERCENT = 4.0
# The proportions of the predefined zones: z10 is 10, 15, 15 mm, 1.5 deg, 15 mm, 1.5 deg.
ZONE_PROPORTIONS: tuple[tuple[str, float], ...] = (
    ("path", 1.0),
    ("rotation_path", 1.5),
    ("external_path", 1.5),
    ("rotation", 0.15),
    ("linear_external", 1.5),
    ("rotary_external", 0.15),
)
