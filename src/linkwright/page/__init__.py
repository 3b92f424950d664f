"""The page in the browser as its server sees it: protocol, admission, open pages, and outboxes."""
