"""What a launch description is made of; nothing here reads a file or starts a process."""
