"""An RTPS participant for services and clients, which communicates only with Fast DDS.

The implementation uses only sockets. It follows the specification, DDSI-RTPS 2.5, and the packets that Fast DDS sends.
`docs/decisions/0067-fast-dds.md` explains why it exists.
"""
