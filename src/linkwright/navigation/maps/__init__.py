"""Map files: the YAML file and the image of an occupancy grid."""
