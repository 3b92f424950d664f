"""The xacro tags, with one module for each family."""
