"""The server, the send queues and the check of origins that nodes with WebSockets share."""
