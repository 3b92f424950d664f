import { describe, expect, it } from "vitest";
import { obviousDisplay } from "../src/state/obvious-display";

function of(topic: string, message: string, ...classes: string[]): string | null {
  const full = classes.map((each) => (each === "World" ? "linkwright/World" : `rviz_default_plugins/${each}`));
  return obviousDisplay({ topic, message, classes: full })?.split("/")[1] ?? null;
}

describe("the obvious display of a topic", () => {
  it("has the name of the message type", () => {
    expect(of("/scan", "sensor_msgs/msg/LaserScan", "LaserScan")).toBe("LaserScan");
    expect(of("/camera/image", "sensor_msgs/msg/Image", "Camera", "DepthCloud", "Detections", "Image")).toBe("Image");
    expect(of("/camera/image/compressed", "sensor_msgs/msg/CompressedImage", "Camera", "Image")).toBe("Image");
    expect(of("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped", "Pose", "PoseWithCovariance")).toBe("PoseWithCovariance");
  });

  it("is that which the topic's name suggests if the type does not decide", () => {
    expect(of("/robot_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("RobotModel");
    expect(of("/world_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("World");
    expect(of("/map", "nav_msgs/msg/OccupancyGrid", "Map")).toBe("Map");
  });

  it("does not exist if no display shows the topic", () => {
    expect(of("/chatter", "std_msgs/msg/Bool")).toBeNull();
  });
});
