"""What the stand-in of rosidl_runtime_py does."""
