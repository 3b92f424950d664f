import { describe, expect, it } from "vitest";
import { obviousDisplay } from "../src/state/obvious-display";

function of(topic: string, message: string, ...classes: string[]): string | null {
  const full = classes.map((each) => (each === "World" ? "linkwright/World" : `rviz_default_plugins/${each}`));
  return obviousDisplay({ topic, message, classes: full })?.split("/")[1] ?? null;
}

describe("the obvious display of a topic", () => {
  it("is called as its messages are", () => {
    expect(of("/scan", "sensor_msgs/msg/LaserScan", "LaserScan")).toBe("LaserScan");
    expect(of("/camera/image", "sensor_msgs/msg/Image", "Camera", "DepthCloud", "Detections", "Image")).toBe("Image");
    expect(of("/camera/image/compressed", "sensor_msgs/msg/CompressedImage", "Camera", "Image")).toBe("Image");
    expect(of("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped", "Pose", "PoseWithCovariance")).toBe("PoseWithCovariance");
  });

  it("is the one that the topic's name speaks of where the type says nothing", () => {
    expect(of("/robot_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("RobotModel");
    expect(of("/world_description", "std_msgs/msg/String", "World", "RobotModel")).toBe("World");
    expect(of("/map", "nav_msgs/msg/OccupancyGrid", "Map")).toBe("Map");
  });

  it("is none where no display shows it", () => {
    expect(of("/chatter", "std_msgs/msg/Bool")).toBeNull();
  });
});
