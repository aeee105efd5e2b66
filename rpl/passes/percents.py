"""What a percent of a joint move counts as in mm, for a language that says speeds and corners of joint moves in mm or
for one that says them in percent. Both are approximations that are reported where they are used.
"""

# A joint move's speed in percent as a tool speed: 100 % is the largest programmable tool speed of the target.
MM_S_PER_PERCENT = 50.0
# A joint blend in percent (of 90 degrees on KUKA) as a zone radius; zones are capped at half the move like the blend.
ZONE_MM_PER_PERCENT = 4.0
