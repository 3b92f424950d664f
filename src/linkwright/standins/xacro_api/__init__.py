"""The API of the Python module ``xacro``, based on the engine of `linkwright.xacro`."""
