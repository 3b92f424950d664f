"""Sound as samples: format, files and features."""
