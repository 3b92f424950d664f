"""Words enrolled by the user, recognised by their distance from the recordings, in any language."""
