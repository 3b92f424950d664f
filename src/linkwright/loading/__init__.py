"""Load code: extensions, deferred imports, and faster variants of standard modules."""
