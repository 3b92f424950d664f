"""A participant of RTPS for services and clients alone, which speaks with Fast DDS.

It depends on nothing but sockets. Its sources are the specification, DDSI-RTPS 2.5, and what Fast DDS sends;
`docs/decisions/0067-fast-dds.md` explains why there is one.
"""
