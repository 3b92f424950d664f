import type { PropertyValue, WorldThing } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import type { Modelling } from "../../state/modelling/modelling";
import { LEAST_SIZE, resized, tidy, type Change } from "../../state/modelling/shapes";
import { strings } from "../../strings";
import type { TreeItem } from "../../tree/tree-item";

/** Roll, pitch and yaw in a pose. */
const ANGLES = 3;

/** The rows of the selection; where several things differ, the value is empty, and an edit is for all of them. */
export function thingItems(modelling: Modelling, angles: AngleUnits): TreeItem[] {
  const things = modelling.selectedThings;
  const [first] = things;
  if (!first) return [];
  const words = strings.modelling;
  const edit = (change: (thing: WorldThing) => Change): void => modelling.change(things.map(change));
  const models = things.every(({ kind }) => kind === "model");
  const alike = models && first.shape !== null && things.every(({ shape }) => shape === first.shape);
  return [
    things.length === 1 ? nameItem(first, modelling) : note("count", words.several(things.length)),
    group("position", words.position, poseItems(things, 0, ["X", "Y", "Z"], 1, edit)),
    group("rotation", `${words.rotation}, ${angles.current === "deg" ? "°" : "rad"}`, poseItems(things, ANGLES, ["Roll", "Pitch", "Yaw"], angles.scale("revolute"), edit)),
    ...(alike ? [group("size", words.size, sizeItems(things, edit))] : []),
    ...(models ? [staticItem(things, edit)] : []),
    ...(things.every(({ colour }) => colour !== null) ? [colourItem(first, edit)] : []),
    ...(things.length === 1 && first.address !== null ? [note("address", words.address, first.address)] : []),
    ...(things.length === 1 && first.parts.length > 0 ? [note("parts", words.parts, first.parts.join(", "))] : []),
  ];
}

type Edit = (change: (thing: WorldThing) => Change) => void;

function nameItem({ name }: WorldThing, modelling: Modelling): TreeItem {
  const set = (value: PropertyValue): void => {
    const text = String(value).trim();
    if (text !== "" && text !== name) modelling.change([{ name, new_name: text }]);
  };
  return { key: "name", name: strings.modelling.name, kind: "string", value: name, description: "", set };
}

function poseItems(things: readonly WorldThing[], from: number, names: readonly string[], scale: number, edit: Edit): TreeItem[] {
  return names.map((name, i) => {
    const values = things.map(({ pose }) => (pose[from + i] ?? 0) * scale);
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((thing) => ({ name: thing.name, pose: thing.pose.with(from + i, tidy(value / scale)) }));
    };
    return { key: `pose/${from + i}`, name, kind: "float", value: common(values), description: "", set };
  });
}

function sizeItems(things: readonly WorldThing[], edit: Edit): TreeItem[] {
  const [first] = things;
  const names = first?.shape ? strings.modelling.lengths[first.shape] : [];
  return names.map((name, i) => {
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((thing) => resized(thing, thing.size.with(i, value)));
    };
    return { key: `size/${i}`, name, kind: "float", value: common(things.map(({ size }) => size[i] ?? 0)), description: "", minimum: LEAST_SIZE, set };
  });
}

function staticItem(things: readonly WorldThing[], edit: Edit): TreeItem {
  const { static: name, staticHint: description } = strings.modelling;
  const value = things.every((thing) => thing.static);
  return { key: "static", name, kind: "bool", value, description, set: (on) => edit((thing) => ({ name: thing.name, static: on === true })) };
}

function colourItem({ colour }: WorldThing, edit: Edit): TreeItem {
  const set = (value: PropertyValue): void => {
    const rgb = channels(String(value));
    edit((thing) => ({ name: thing.name, colour: [...rgb, thing.colour?.[3] ?? 1] }));
  };
  return { key: "colour", name: strings.modelling.colour, kind: "color", value: hex(colour ?? []), description: "", set };
}

/** `#rrggbb` of red, green, blue from 0 to 1. */
export function hex(colour: readonly number[]): string {
  const channel = (i: number): string => Math.round(Math.max(0, Math.min(1, colour[i] ?? 0)) * 255).toString(16).padStart(2, "0");
  return `#${channel(0)}${channel(1)}${channel(2)}`;
}

function channels(text: string): number[] {
  return [1, 3, 5].map((at) => Math.round((parseInt(text.slice(at, at + 2), 16) / 255) * 1e4) / 1e4);
}

function group(key: string, name: string, items: readonly TreeItem[]): TreeItem {
  return { key, name, kind: "group", value: "", description: "", strong: true, expanded: true, children: () => items };
}

function note(key: string, name: string, value = ""): TreeItem {
  return { key, name, kind: "group", value, description: "", strong: value === "" };
}

/** The one value that all have; null where they differ. */
function common(values: readonly number[]): number | null {
  const [first = null] = values;
  return values.every((value) => value === first) ? first : null;
}
