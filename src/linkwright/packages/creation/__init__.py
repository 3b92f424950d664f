"""Creation of new packages."""
