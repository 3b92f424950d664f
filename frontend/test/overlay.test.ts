import { expect, it } from "vitest";
import { iconNameOf } from "../src/icons";
import { wrapLine } from "../src/scene/displays/overlay";

const measure = (text: string): number => text.length;

it("a line is broken between words", () => {
  expect(wrapLine("battery is low", 10, measure)).toEqual(["battery is", "low"]);
  expect(wrapLine("battery is low", 0, measure)).toEqual(["battery is low"]);
  expect(wrapLine("incomprehensible text", 5, measure)).toEqual(["incomprehensible", "text"]);
  expect(wrapLine("", 5, measure)).toEqual([""]);
});

it("a class has the icon of its name, whatever separates the package", () => {
  expect(iconNameOf("rviz_plugins/PathWithLaneId")).toBe("PathWithLaneId");
  expect(iconNameOf("rviz_plugins::PoseHistory")).toBe("PoseHistory");
});
