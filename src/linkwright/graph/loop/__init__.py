"""Running of callbacks: node handles, entities, timers, rates, futures, and the dispatcher."""
