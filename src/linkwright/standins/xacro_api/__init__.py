"""What the Python module ``xacro`` offers, on the engine of `linkwright.xacro`."""
