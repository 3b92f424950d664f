"""The server side of the page: protocol, access control, open pages, and outboxes."""
