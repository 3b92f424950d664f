"""Page features of a viewer, which handle requests that are not about displays; each is a module or a package."""
