import { describe, expect, it } from "vitest";
import { findObviousDisplay } from "../src/state/obvious-display";

function findName(topic: string, message: string, ...classes: string[]): string | null {
  const classNames = classes.map((name) => (name === "World" ? "linkwright/World" : `rviz_default_plugins/${name}`));
  return findObviousDisplay({ topic, message, classes: classNames })?.split("/")[1] ?? null;
}

describe("the obvious display of a topic", () => {
  it("has the name of the message type", () => {
    expect(findName("/scan", "sensor_msgs/msg/LaserScan", "LaserScan")).toBe("LaserScan");
    expect(findName("/camera/image", "sensor_msgs/msg/Image", "Camera", "DepthCloud", "Detections", "Image")).toBe("Image");
    expect(findName("/camera/image/compressed", "sensor_msgs/msg/CompressedImage", "Camera", "Image")).toBe("Image");
    expect(findName("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped", "Pose", "PoseWithCovariance")).toBe("PoseWithCovariance");
  });

  it("is the one that the topic's name suggests if the type does not decide", () => {
    expect(findName("/robot_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("RobotModel");
    expect(findName("/world_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("World");
    expect(findName("/map", "nav_msgs/msg/OccupancyGrid", "Map")).toBe("Map");
  });

  it("does not exist if no display shows the topic", () => {
    expect(findName("/chatter", "std_msgs/msg/Bool")).toBeNull();
  });
});
