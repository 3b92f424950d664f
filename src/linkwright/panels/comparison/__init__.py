"""Two descriptions in one scene: the old robot together with the new one, and a list of the differences."""
