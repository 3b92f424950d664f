"""The features of pages besides displays, a module or a package each."""
