"""Two descriptions in one scene: the old one beside the new one, and a list of the differences."""
