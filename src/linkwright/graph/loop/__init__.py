"""Running callbacks: nodes and their entities, timers, rates, futures, and the dispatcher of the event loop."""
