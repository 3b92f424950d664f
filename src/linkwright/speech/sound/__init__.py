"""Sound as samples: formats, files and features."""
