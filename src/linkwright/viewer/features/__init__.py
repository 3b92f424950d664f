"""The features of pages besides displays, each a module or a package."""
