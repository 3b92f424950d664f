"""The rules, a module for each group or topic; the registry finds them by looking at every module here."""
