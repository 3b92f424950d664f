"""Words that the user enrolled: recognised by their distance from what was said then, in any language."""
