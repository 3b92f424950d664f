"""The requests of an editor, by subject: each module adds its requests to a server."""
