"""Sound as samples: its form, files, features."""
