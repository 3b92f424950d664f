"""Loading of code: extensions, deferred imports, and lean standard library modules."""
