import { expect, test } from "vitest";
import { describePoint } from "../src/scene/displays/cloud-description";
import { createMapPalette } from "../src/scene/displays/map-palette";
import { findNearestPoint } from "../src/scene/objects/nearest-point";
import { createCameraPose, computeZoom, createProjection } from "../src/scene/images/camera-projection";
import { convertToRgba } from "../src/scene/images/image-canvas";
import { isShownInCamera } from "../src/scene/images/shown-in-camera";
import { DisplayState } from "../src/state/displays";
import { PropertyNode, PropertyRows } from "../src/state/properties";
import { Vector3 } from "three";
import { createDisplay, createProperty } from "./messages";

const ALONG_X = [1, 0, 0] as const;
const ORIGIN = [0, 0, 0] as const;

test("finds the first point near a ray", () => {
  const points = new Float32Array([5, 0.05, 0, 2, 0.05, 0, -1, 0, 0, 1, 1, 0]);
  expect(findNearestPoint(points, ORIGIN, ALONG_X, 0.1, 0)).toEqual({ index: 1, distance: 2 });
  expect(findNearestPoint(points, ORIGIN, ALONG_X, 0.01, 0)).toBeNull();
});

test("a pointer covers a larger area at a greater distance", () => {
  const points = new Float32Array([10, 0.05, 0]);
  expect(findNearestPoint(points, ORIGIN, ALONG_X, 0, 0.004)).toBeNull();
  expect(findNearestPoint(points, ORIGIN, ALONG_X, 0, 0.006)?.index).toBe(0);
});

test("a point is described as in RViz", () => {
  const fields = { intensity: 0.5, rgb: "#102030ff", bad: "nan" };
  const { name, children } = describePoint(7, "", new Float32Array([1, 2, 3.5]), fields);
  expect(name).toBe("Point 7");
  expect(children?.map((item) => [item.name, item.value])).toEqual([
    ["Position", "1; 2; 3.5"],
    ["3: intensity", "0.5"],
    ["4: rgb", "16; 32; 48"],
    ["alpha", "1"],
    ["5: bad", "nan"],
  ]);
  expect(describePoint(0, "12", new Float32Array(3), null).name).toBe("Point 0 [cloud 12]");
});

function readColor(palette: Uint8Array, value: number): number[] {
  return [...palette.subarray(value * 4, value * 4 + 4)];
}

test("maps have RViz's shades of gray", () => {
  const map = createMapPalette("map", null);
  expect([0, 50, 100].map((value) => readColor(map, value)[0])).toEqual([255, 128, 0]);
  expect(readColor(map, 101)).toEqual([0, 255, 0, 255]);
  expect(readColor(map, 128)).toEqual([255, 0, 0, 255]);
  expect(readColor(map, 254)).toEqual([255, 255, 0, 255]);
  expect(readColor(map, 255)).toEqual([0x70, 0x89, 0x86, 255]);
});

test("costmaps range from blue to red, with transparent free cells and marked obstacles", () => {
  const costmap = createMapPalette("costmap", null);
  expect(readColor(costmap, 0)).toEqual([0, 0, 0, 0]);
  expect(readColor(costmap, 1)).toEqual([2, 0, 253, 255]);
  expect(readColor(costmap, 98)).toEqual([249, 0, 6, 255]);
  expect(readColor(costmap, 99)).toEqual([0, 255, 255, 255]);
  expect(readColor(costmap, 100)).toEqual([255, 0, 255, 255]);
});

test("a threshold makes cells free or occupied", () => {
  expect([49, 50].map((value) => readColor(createMapPalette("map", 50), value)[0])).toEqual([255, 0]);
  expect(readColor(createMapPalette("costmap", 50), 0)).toEqual([0, 0, 255, 255]);
  expect(readColor(createMapPalette("costmap", 50), 50)).toEqual([255, 0, 0, 255]);
  expect([49, 50, 255].map((value) => readColor(createMapPalette("raw", 50), value)[0])).toEqual([0, 255, 255]);
  expect(readColor(createMapPalette("raw", null), 200)).toEqual([200, 200, 200, 255]);
});

test("pixels of all encodings are converted to red, green, blue and alpha", () => {
  const frame = { width: 1, height: 1, columns: 1, rows: 1, camera: null, quality: 0, kind: "image_frame" } as const;
  const convert = (encoding: "gray" | "rgb" | "rgba", data: number[]): number[] => [
    ...convertToRgba({ ...frame, encoding, data: new Uint8Array(data) }),
  ];
  expect(convert("gray", [7])).toEqual([7, 7, 7, 255]);
  expect(convert("rgb", [1, 2, 3])).toEqual([1, 2, 3, 255]);
  expect(convert("rgba", [1, 2, 3, 4])).toEqual([1, 2, 3, 4]);
});

const CAMERA = {
  width: 640,
  height: 480,
  focal_x: 320,
  focal_y: 320,
  center_x: 320,
  center_y: 240,
  offset_x: 0.1,
  offset_y: 0,
};

test("an image keeps its aspect ratio in any window", () => {
  expect(computeZoom(CAMERA, 1, 640, 480)).toEqual([1, 1]);
  const [wideX, wideY] = computeZoom(CAMERA, 1, 1280, 480);
  expect([wideX, wideY]).toEqual([0.5, 1]);
  const [highX, highY] = computeZoom(CAMERA, 1, 640, 960);
  expect([highX, highY]).toEqual([1, 0.5]);
});

test("the camera projects according to its matrix", () => {
  const matrix = createProjection(CAMERA, [1, 1], 100);
  // One meter to the right at a distance of two: 160 pixels of the 320 from the center to the edge.
  const position = new Vector3(1, 0, -2).applyMatrix4(matrix);
  expect(position.x).toBeCloseTo(0.5);
  expect(position.y).toBeCloseTo(0);
  const shifted = createProjection({ ...CAMERA, center_x: 480 }, [1, 1], 100);
  expect(new Vector3(0, 0, -1).applyMatrix4(shifted).x).toBeCloseTo(0.5);
  expect(new Vector3(0, 0, -100).applyMatrix4(matrix).z).toBeCloseTo(1);
});

test("the camera looks along z of its image, offset from its frame", () => {
  const pose = createCameraPose(CAMERA);
  expect(new Vector3(0, 0, -1).applyMatrix4(pose).toArray()).toEqual([0.1, expect.closeTo(0), expect.closeTo(1)]);
});

test("a display is shown in a camera if its box and those of its groups are ticked", () => {
  const createBox = (path: string, name: string, isTicked: boolean, children: ReturnType<typeof createProperty>[] = []) =>
    createProperty({ id: path, name, kind: "bool", value: isTicked, children });
  const createRows = (isCloudTicked: boolean, isGroupTicked: boolean): PropertyRows =>
    new PropertyRows([
      new PropertyNode(createBox("v", "Visibility", true, [createBox("g", "Sensors", isGroupTicked, [createBox("c", "Cloud", isCloudTicked)])])),
    ]);
  const group = new DisplayState(createDisplay({ id: "1", cls: "rviz_common/Group", name: "Sensors" }));
  const cloud = new DisplayState(createDisplay({ id: "2", name: "Cloud" }));
  cloud.group = group;
  expect(isShownInCamera(createRows(true, true), cloud)).toBe(true);
  expect(isShownInCamera(createRows(false, true), cloud)).toBe(false);
  expect(isShownInCamera(createRows(true, false), cloud)).toBe(false);
  expect(isShownInCamera(new PropertyRows([]), cloud)).toBe(true);
});
