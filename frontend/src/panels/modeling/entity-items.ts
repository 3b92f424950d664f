import type { PropertyValue, WorldEntity } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import type { Modeling } from "../../state/modeling/modeling";
import { MIN_SIZE, resizeChange, roundNoise, type Change } from "../../state/modeling/shapes";
import { strings } from "../../strings";
import type { TreeItem } from "../../tree/tree-item";

/** The index of roll, followed by pitch and yaw, in a pose. */
const ROLL = 3;

/**
 * Returns the property rows of the selection. A value that differs among the entities is shown empty; an edit applies
 * to all of them.
 */
export function entityItems(modeling: Modeling, angles: AngleUnits): TreeItem[] {
  const entities = modeling.selectedEntities;
  const [first] = entities;
  if (!first) return [];
  const texts = strings.modeling;
  const edit = (change: (entity: WorldEntity) => Change): void => modeling.change(entities.map(change));
  const models = entities.every(({ kind }) => kind === "model");
  const alike = models && first.shape !== null && entities.every(({ shape }) => shape === first.shape);
  return [
    entities.length === 1 ? nameItem(first, modeling) : note("count", texts.several(entities.length)),
    group("position", texts.position, poseItems(entities, 0, ["X", "Y", "Z"], 1, edit)),
    group("rotation", `${texts.rotation}, ${angles.current === "deg" ? "°" : "rad"}`, poseItems(entities, ROLL, ["Roll", "Pitch", "Yaw"], angles.scale("revolute"), edit)),
    ...(alike ? [group("size", texts.size, sizeItems(entities, edit))] : []),
    ...(models ? [staticItem(entities, edit)] : []),
    ...(entities.every(({ color }) => color !== null) ? [colorItem(first, edit)] : []),
    ...(entities.length === 1 && first.address !== null ? [note("address", texts.address, first.address)] : []),
    ...(entities.length === 1 && first.parts.length > 0 ? [note("parts", texts.parts, first.parts.join(", "))] : []),
  ];
}

type Edit = (change: (entity: WorldEntity) => Change) => void;

function nameItem({ name }: WorldEntity, modeling: Modeling): TreeItem {
  const set = (value: PropertyValue): void => {
    const text = String(value).trim();
    if (text !== "" && text !== name) modeling.change([{ name, new_name: text }]);
  };
  return { key: "name", name: strings.modeling.name, kind: "string", value: name, description: "", set };
}

function poseItems(entities: readonly WorldEntity[], from: number, names: readonly string[], scale: number, edit: Edit): TreeItem[] {
  return names.map((name, i) => {
    const values = entities.map(({ pose }) => (pose[from + i] ?? 0) * scale);
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((entity) => ({ name: entity.name, pose: entity.pose.with(from + i, roundNoise(value / scale)) }));
    };
    return { key: `pose/${from + i}`, name, kind: "float", value: commonValue(values), description: "", set };
  });
}

function sizeItems(entities: readonly WorldEntity[], edit: Edit): TreeItem[] {
  const [first] = entities;
  const names = first?.shape ? strings.modeling.lengths[first.shape] : [];
  return names.map((name, i) => {
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((entity) => resizeChange(entity, entity.size.with(i, value)));
    };
    return { key: `size/${i}`, name, kind: "float", value: commonValue(entities.map(({ size }) => size[i] ?? 0)), description: "", minimum: MIN_SIZE, set };
  });
}

function staticItem(entities: readonly WorldEntity[], edit: Edit): TreeItem {
  const { static: name, staticHint: description } = strings.modeling;
  const value = entities.every((entity) => entity.static);
  return { key: "static", name, kind: "bool", value, description, set: (on) => edit((entity) => ({ name: entity.name, static: on === true })) };
}

function colorItem({ color }: WorldEntity, edit: Edit): TreeItem {
  const set = (value: PropertyValue): void => {
    const rgb = parseChannels(String(value));
    edit((entity) => ({ name: entity.name, color: [...rgb, entity.color?.[3] ?? 1] }));
  };
  return { key: "color", name: strings.modeling.color, kind: "color", value: hex(color ?? []), description: "", set };
}

/** Returns `#rrggbb` for red, green and blue from 0 to 1. */
export function hex(color: readonly number[]): string {
  const channel = (i: number): string => Math.round(Math.max(0, Math.min(1, color[i] ?? 0)) * 255).toString(16).padStart(2, "0");
  return `#${channel(0)}${channel(1)}${channel(2)}`;
}

function parseChannels(text: string): number[] {
  return [1, 3, 5].map((at) => Math.round((parseInt(text.slice(at, at + 2), 16) / 255) * 1e4) / 1e4);
}

function group(key: string, name: string, items: readonly TreeItem[]): TreeItem {
  return { key, name, kind: "group", value: "", description: "", strong: true, expanded: true, children: () => items };
}

function note(key: string, name: string, value = ""): TreeItem {
  return { key, name, kind: "group", value, description: "", strong: value === "" };
}

/** Returns the value that all have in common; null if they differ. */
function commonValue(values: readonly number[]): number | null {
  const [first = null] = values;
  return values.every((value) => value === first) ? first : null;
}
