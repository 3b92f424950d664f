"""The comparison of two descriptions: the old and the new robot in one scene, and a list of differences."""
