"""Node parameters: values, constraints, services, events and files."""
