"""Compare the arguments of launch files with what the files and their callers use."""
