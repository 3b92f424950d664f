"""Type hashes, compared with those of ROS 2 Jazzy (published by several projects)."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import JointState, get_action, get_service, type_hash

PUBLISHED = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "std_msgs/msg/Float32": "7170d3d8f841f7be3172ce5f4f59f3a4d7f63b0447e8b33327601ad64d83d6e2",
    "builtin_interfaces/msg/Time": "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197",
    "rosgraph_msgs/msg/Clock": "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
    "geometry_msgs/msg/Point": "6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881",
    "geometry_msgs/msg/Quaternion": "8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684",
    "geometry_msgs/msg/PoseWithCovariance": "9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb",
    "geometry_msgs/msg/TransformStamped": "0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "nav_msgs/msg/Odometry": "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
    "sensor_msgs/msg/CameraInfo": "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275",
    "sensor_msgs/msg/Image": "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
    "sensor_msgs/msg/PointCloud2": "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "tf2_msgs/msg/TF2Error": "db2485e7d6a0ec75bf087e058ee45df682acc3a621ca7780503d10aac141809a",
    "rcl_interfaces/msg/Log": "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac",
    "rcl_interfaces/msg/ParameterEvent": "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
    "rcl_interfaces/srv/GetParameters": "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc",
    "rcl_interfaces/srv/GetParameterTypes": "da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca",
    "rcl_interfaces/srv/SetParameters": "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0",
    "rcl_interfaces/srv/SetParametersAtomically": "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd",
    "rcl_interfaces/srv/ListParameters": "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
    "rcl_interfaces/srv/DescribeParameters": "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
    "action_msgs/msg/GoalStatusArray": "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "example_interfaces/srv/SetBool": "a69782e5631b12e15c8e218410de1685bbf13e382718295adad14037a24afbe8",
    "example_interfaces/msg/MultiArrayLayout": "ba42ea30074e5826a1e91f70f3660dda2996937169487f877fc20a8a402e2c27",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
    "example_interfaces/action/Fibonacci_GetResult": "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
    "action_tutorials_interfaces/action/Fibonacci_SendGoal": (
        "a0603060ed69fe2dfbd1a6f3b982a1749957ef346e4a4d2b311a05e305ec37bb"
    ),
    "action_tutorials_interfaces/action/Fibonacci_GetResult": (
        "8b47e383f1e31f6d8df6417ab54957e7d5ea24dad315646ad711ac3fdea81d58"
    ),
    "action_tutorials_interfaces/action/Fibonacci_FeedbackMessage": (
        "50fc26b9cac313652ecbeab3adf9b5414d59fd4d4d5f9058ddcc7525169927f1"
    ),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_type_hash_matches_published_hash(name):
    assert type_hash(name) == "RIHS01_" + PUBLISHED[name]


def test_type_hash_accepts_classes():
    assert type_hash(JointState) == type_hash("sensor_msgs/JointState")
    action = get_action("example_interfaces/action/Fibonacci")
    assert type_hash(action.Impl.SendGoalService) == type_hash("example_interfaces/action/Fibonacci_SendGoal")
    assert type_hash(action) != type_hash(action.Goal)
    assert type_hash(get_service("std_srvs/srv/SetBool")) != type_hash("example_interfaces/srv/SetBool")


def test_hash_of_iron_discovery_message_matches(monkeypatch):
    # Iron's Gid is shorter than Humble's. The hash includes the name of the package, so it replaces Humble's.
    from linkwright.diagnostics import SourceText
    from linkwright.messages.definitions import hashing
    from linkwright.messages.definitions.parser import parse_interface

    class Known:
        def has_message(self, type_name):
            return True

        def find_hint(self, type_name):
            return None

    texts = {
        "Gid": "char[16] data",
        "NodeEntitiesInfo": (
            "string<=256 node_namespace\nstring<=256 node_name\nGid[] reader_gid_seq\nGid[] writer_gid_seq"
        ),
        "ParticipantEntitiesInfo": "Gid gid\nNodeEntitiesInfo[] node_entities_info_seq",
    }
    names = {f"rmw_dds_common/msg/{name}": text for name, text in texts.items()}
    definitions = {name: parse_interface(SourceText("<a>", text), name, Known()) for name, text in names.items()}

    class Library:
        def definition(self, name):
            return definitions[name]

    monkeypatch.setattr(hashing, "LIBRARY", Library())
    described = hashing.make_type_description(definitions["rmw_dds_common/msg/ParticipantEntitiesInfo"])
    assert hashing.compute_hash(described) == "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"


def test_type_hash_rejects_unknown_name():
    with pytest.raises(LinkwrightError, match="there is no message 'std_msgs/msg/Strng'"):
        type_hash("std_msgs/msg/Strng")
