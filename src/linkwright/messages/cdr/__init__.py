"""CDR: the layout of a structure's bytes, and the functions that read and write them."""
