"""Publishers, subscriptions, services and clients, and the events of their quality of service."""
