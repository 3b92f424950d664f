"""Loading code: extensions of other packages, deferred names, and lean stand-ins of the standard library."""
