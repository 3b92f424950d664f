"""Functions for the whole process: arguments, standard streams, Ctrl-C and the event loop."""
