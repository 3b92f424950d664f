"""The elements of launch descriptions; nothing here reads a file or starts a process."""
