"""The untrusted side, which runs in the locked worker as the package `boxed`.

It imports nothing but numpy and the standard library, and shares with the trusted side only `wire`.
"""
