"""A reader of configuration files in Lua, such as those of Cartographer."""
