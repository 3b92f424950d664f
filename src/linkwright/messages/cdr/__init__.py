"""CDR: how the bytes of a structure lie, and the functions that read and write them."""
