"""CDR: the byte layout of structures, and the functions that read and write them."""
