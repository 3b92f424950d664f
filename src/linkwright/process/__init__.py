"""Process-wide matters: arguments, standard streams, Ctrl-C, event loop, processors, clock unit."""
