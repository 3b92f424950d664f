"""The page features of a viewer, each a module or package, which handle most requests of pages."""
