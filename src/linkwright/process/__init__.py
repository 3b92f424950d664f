"""Functions for the whole process: arguments, standard streams, Ctrl-C, the event loop, forked programs."""
