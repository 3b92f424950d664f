"""Images of robots and worlds, rendered without a browser, a graphics card or OpenGL.

The same scene gives the same pixels on every machine (docs/decisions/0135-pictures-by-arithmetic.md).
"""
