"""The substitute for the package urdf_launch, whose launch files show a robot description."""
