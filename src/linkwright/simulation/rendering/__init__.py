"""Rendering of a simulated world, by OpenGL or, if no OpenGL library is available, by ray casting."""
