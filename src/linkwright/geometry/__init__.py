"""Rotations, poses, shapes, meshes and mass properties, without a word about files of robots.

`single` and `arrays` hold the same operations, for one rotation or pose in plain floats and for many in arrays; all but
`shapes` and `single` need numpy, which is why nothing is imported here.
"""
