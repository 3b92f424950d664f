"""An RTPS participant only for services and clients, which communicates with Fast DDS.

It depends only on sockets. It is based on the specification, DDSI-RTPS 2.5, and on the packets that Fast DDS sends.
`docs/decisions/0067-fast-dds.md` explains why it exists.
"""
