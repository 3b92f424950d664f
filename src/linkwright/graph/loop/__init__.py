"""The parts that run callbacks: node handles, entities, timers, futures and the dispatcher."""
