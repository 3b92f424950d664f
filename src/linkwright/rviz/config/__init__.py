"""Reading, checking, editing and saving of RViz configuration files."""
