"""Images of a simulated world: by OpenGL on the system's graphics library, or by ray casting where it has none."""
