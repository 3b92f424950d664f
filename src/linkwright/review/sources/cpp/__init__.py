"""Find names and values in the text of C++ sources."""
