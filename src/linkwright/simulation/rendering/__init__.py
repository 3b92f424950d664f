"""Render a simulated world by OpenGL, or by ray casting without an OpenGL library."""
