import { describe, expect, it, vi } from "vitest";
import { formatPlace, shortenPath } from "../src/panels/place";
import { listMaterialFiles } from "../src/scene/meshes/obj";
import { formatColor, parseColor } from "../src/tree/colors";
import { clamp, formatFixed, formatNumber, parseNumber, chooseStep } from "../src/tree/numbers";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

describe("numbers in rows", () => {
  it("show the requested digits, and an exponent if they would fill the row", () => {
    const positions = [0.12345, -0.00004, 999999.5, -1e16, Infinity];
    expect(positions.map((position) => formatFixed(position, 3))).toEqual(["0.123", "0.000", "999999.500", "-1.00e+16", "Infinity"]);
  });

  it("show six significant digits", () => {
    expect([0.785398163, 1e-7, 10, -0, 1234567].map(formatNumber)).toEqual([
      "0.785398",
      "1e-7",
      "10",
      "0",
      "1234570",
    ]);
  });

  it("accept a point or a comma; other text is refused", () => {
    expect(["1.5", " -2 ", "0,25", "1e-3"].map(parseNumber)).toEqual([1.5, -2, 0.25, 0.001]);
    expect(["", "abc", "1 2", "Infinity"].map(parseNumber)).toEqual([null, null, null, null]);
  });

  it("are clamped to their limits", () => {
    expect([clamp(5, 0, 1), clamp(-5, 0, 1), clamp(5, null, null)]).toEqual([1, 0, 5]);
  });

  it("change by steps of a tenth of their size", () => {
    expect([chooseStep(0, false), chooseStep(0.5, false), chooseStep(45, false), chooseStep(45, true)]).toEqual([0.01, 0.01, 1, 1]);
  });
});

describe("colors in rows", () => {
  it("are formatted as in RViz and parsed in either form", () => {
    expect(formatColor("#303030")).toBe("48; 48; 48");
    expect(["48; 48; 48", "48 48 48", "48,48,48", "#303030"].map(parseColor)).toEqual(Array(4).fill("#303030"));
    expect(["48; 48", "256; 0; 0", "red", "1.5; 0; 0"].map(parseColor)).toEqual(Array(4).fill(null));
  });
});

describe("source positions", () => {
  it("show the end of a long path", () => {
    expect(shortenPath("/home/me/ws/src/mbot/urdf/mbot.xacro")).toBe("…/mbot/urdf/mbot.xacro");
    expect(shortenPath("mbot.xacro")).toBe("mbot.xacro");
    expect(formatPlace("mbot.xacro", 3, null)).toBe("mbot.xacro:3");
  });
});

describe("OBJ files", () => {
  it("list their material files one per line, including names with blanks", () => {
    expect(listMaterialFiles("mtllib a.mtl\r\n# mtllib no.mtl\nv 0 0 0\n  mtllib my robot.mtl\n")).toEqual([
      "a.mtl",
      "my robot.mtl",
    ]);
  });
});
