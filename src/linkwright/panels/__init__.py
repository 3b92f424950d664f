"""The page features of a viewer, which handle most requests of pages; each is a module or a package."""
