"""Images of a simulated world, from OpenGL in the system's graphics library, or from ray casting if there is none."""
