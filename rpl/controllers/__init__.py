"""Robot controllers on the network: fetching their programs, sending programs to them, looking at them, standing in
for them.

`link` is what a connection to any controller can do, `profile` is which controller is meant, `profiles` reads that,
`fetching` and `sending` are the rules of taking and bringing programs, once for all makers: nothing here starts a
motion. Each maker (and each plain way of carrying files) is a folder with a `VENDOR`, its client and, where there
is one, its virtual controller, which `virtual` holds the frame for. `vendors` finds the folders.
"""
