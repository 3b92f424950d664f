"""Loading of code: extensions, deferred imports, and fast variants of standard modules."""
