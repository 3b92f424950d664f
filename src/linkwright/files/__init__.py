"""Files and folders of the user: reading, writing, and where the program keeps its own."""
