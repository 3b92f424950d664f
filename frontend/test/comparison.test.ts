import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { ComparedDescriptions, ComparedItem } from "../src/protocol";
import { shortenPlace } from "../src/panels/place";
import { ComparisonState, groupDifferences, MARK_COLORS, listUsedMarks } from "../src/state/comparison";

function createItem(part: Partial<ComparedItem> = {}): ComparedItem {
  return {
    subject: "link", name: "arm", kind: "changed", property: "mass", old: "1", new: "2", unit: "kg",
    element: "arm", element_kind: "link", in_old: false, old_place: null, new_place: null, ...part,
  };
}

const COMPARED: ComparedDescriptions & { type: "compared_descriptions" } = {
  type: "compared_descriptions",
  old: { display: "display-2", label: "old.urdf", marks: { camera: "removed" } },
  new: { display: "display-1", label: "new.urdf", marks: { arm: "changed" } },
  joints: {},
  shapes: { arm: "arm" },
  items: [
    createItem(),
    createItem({ property: "origin xyz" }),
    createItem({ subject: "joint" }),
    createItem({ name: "camera", kind: "removed", property: "", element: "camera", in_old: true }),
  ],
};

describe("sources of descriptions", () => {
  it.each([
    ["HEAD:robots/arm/urdf/arm.urdf:3:1", "HEAD:…/urdf/arm.urdf:3:1"],
    ["HEAD:arm.urdf:3:1", "HEAD:arm.urdf:3:1"],
    ["main~2:urdf/arm.urdf", "main~2:urdf/arm.urdf"],
    ["/home/me/robots/arm/urdf/arm.urdf:3:1", "…/urdf/arm.urdf:3:1"],
    ["urdf/arm.urdf:3:1", "urdf/arm.urdf:3:1"],
  ])("%s is %s", (text, short) => {
    expect(shortenPlace(text)).toBe(short);
  });
});

describe("two descriptions in one scene", () => {
  let connection: Connection;
  let comparison: ComparisonState;

  beforeEach(() => {
    connection = new Connection("ws://localhost/ws");
    comparison = new ComparisonState(connection);
    connection.message.emit(COMPARED);
  });

  it("draws the old robot in one color, behind the new one, and removed links more opaque in a color of their own", () => {
    const oldLink = comparison.overrideOf("display-2", "arm");
    const removedLink = comparison.overrideOf("display-2", "camera");
    expect(oldLink).toMatchObject({ isBehind: true, isOpaque: false });
    expect(removedLink).toMatchObject({ isBehind: true, isOpaque: true });
    expect(removedLink?.color.map((part) => Math.round(part * 255))).toEqual([0xcc, 0x33, 0x77]);
    expect(comparison.isOld("display-2")).toBe(true);
  });

  it("colors only the differences of the new robot, and nothing while marks are off", () => {
    expect(comparison.overrideOf("display-1", "arm")?.isBehind).toBeUndefined();
    expect(comparison.overrideOf("display-1", "base")).toBeNull();
    expect(comparison.overrideOf("display-7", "arm")).toBeNull();
    const onChanged = vi.fn();
    comparison.changed.on(onChanged);
    comparison.areMarksShown = false;
    expect(onChanged).toHaveBeenCalledTimes(1);
    expect(comparison.overrideOf("display-1", "arm")).toBeNull();
    expect(comparison.overrideOf("display-2", "camera")).toEqual(comparison.overrideOf("display-2", "arm"));
  });

  it("names the link or joint that shows a difference, in the robot that has it", () => {
    const [arm, , , camera] = COMPARED.items;
    expect(arm && comparison.elementOf(arm)).toEqual({ display: "display-1", kind: "link", name: "arm" });
    expect(camera && comparison.elementOf(camera)).toEqual({ display: "display-2", kind: "link", name: "camera" });
    expect(comparison.elementOf(createItem({ element: "" }))).toBeNull();
  });

  it("has no legend for a program that did not announce itself", () => {
    connection.message.emit({ type: "hello", protocol: 1, version: "", title: "", run: "1" });
    expect(comparison.compared).toBeNull();
    expect(comparison.overrideOf("display-2", "arm")).toBeNull();
    expect(comparison.isOld("")).toBe(false);
  });

  it("groups the differences of one element, and lists only kinds that occur in the legend", () => {
    const groups = groupDifferences(COMPARED.items);
    expect(groups.map(({ items, kind }) => [items.length, kind])).toEqual([[2, "changed"], [1, "changed"], [1, "removed"]]);
    expect(listUsedMarks([COMPARED.new, COMPARED.old])).toEqual(["changed", "removed", "old"]);
  });
});

/** Machado, Oliveira and Fernandes (2009), severity 1: how people without one type of cone see linear colors. */
const CONE_MATRICES: Readonly<Record<string, readonly (readonly number[])[]>> = {
  all: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  "no red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  "no green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  "no blue": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};

function multiply(matrix: readonly (readonly number[])[], vector: readonly number[]): number[] {
  return matrix.map((row) => row.reduce((sum, value, i) => sum + value * (vector[i] ?? 0), 0));
}

/** Returns CIE L*a*b* of a color as seen with a color vision deficiency. */
function toLab(hex: string, coneMatrix: readonly (readonly number[])[]): number[] {
  const linear = [1, 3, 5].map((start) => {
    const part = parseInt(hex.slice(start, start + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  const perceived = multiply(coneMatrix, linear).map((part) => Math.min(1, Math.max(0, part)));
  const xyz = multiply([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]], perceived);
  const [x = 0, y = 0, z = 0] = [0.9505, 1, 1.089].map((white, i) => {
    const ratio = (xyz[i] ?? 0) / white;
    return ratio > 0.008856 ? Math.cbrt(ratio) : 7.787 * ratio + 16 / 116;
  });
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

describe.each(Object.entries(CONE_MATRICES))("to eyes with cones: %s", (_, coneMatrix) => {
  const colors = Object.entries(MARK_COLORS);
  const pairs = colors.flatMap(([firstName, a], i) => colors.slice(i + 1).map(([secondName, b]) => [firstName, secondName, a, b] as const));

  it.each(pairs)("%s and %s differ (CIE76, 25; 2.3 is just seen)", (_firstName, _secondName, a, b) => {
    const [firstLab, secondLab] = [toLab(a, coneMatrix), toLab(b, coneMatrix)];
    expect(Math.hypot(...firstLab.map((value, i) => value - (secondLab[i] ?? 0)))).toBeGreaterThan(25);
  });
});
