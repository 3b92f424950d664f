"""Publishers, subscriptions, services and clients, and their QoS events."""
