"""The server side of the page in the browser: protocol, access control, open pages, and outboxes."""
