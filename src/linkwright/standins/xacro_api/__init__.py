"""The API of the Python module ``xacro``, on the engine of `linkwright.xacro`."""
