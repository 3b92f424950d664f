"""Page features of a viewer, which handle requests besides displays, each a module or a package."""
