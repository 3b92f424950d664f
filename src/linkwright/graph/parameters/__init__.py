"""Node parameters: their values, rules, services, events and files."""
