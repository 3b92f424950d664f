"""The comparison of two descriptions: both robots in one scene, and a list of differences."""
