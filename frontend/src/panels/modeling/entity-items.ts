import type { PropertyValue, WorldEntity } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import type { Modeling } from "../../state/modeling/modeling";
import { MIN_SIZE_M, createResizeChange, roundNoise, type Change } from "../../state/modeling/shapes";
import { strings } from "../../strings";
import type { TreeItem } from "../../tree/tree-item";

/** The index of roll, followed by pitch and yaw, in a pose. */
const ROLL_INDEX = 3;

/**
 * Returns the property rows of the selection. A value that differs among the entities is shown empty; an edit applies
 * to all of them.
 */
export function createEntityItems(modeling: Modeling, angles: AngleUnits): TreeItem[] {
  const entities = modeling.selectedEntities;
  const [firstEntity] = entities;
  if (!firstEntity) return [];
  const texts = strings.modeling;
  const edit = (change: (entity: WorldEntity) => Change): void => modeling.change(entities.map(change));
  const areModels = entities.every(({ kind }) => kind === "model");
  const angleUnit = angles.current === "deg" ? "°" : "rad";
  const haveSameShape = areModels && firstEntity.shape !== null && entities.every(({ shape }) => shape === firstEntity.shape);
  return [
    entities.length === 1 ? createNameItem(firstEntity, modeling) : createNote("count", texts.selectedCount(entities.length)),
    createGroup("position", texts.position, createPoseItems(entities, 0, ["X", "Y", "Z"], 1, edit)),
    createGroup("rotation", `${texts.rotation}, ${angleUnit}`, createPoseItems(entities, ROLL_INDEX, ["Roll", "Pitch", "Yaw"], angles.scaleOf("revolute"), edit)),
    ...(haveSameShape ? [createGroup("size", texts.size, createSizeItems(entities, edit))] : []),
    ...(areModels ? [createStaticItem(entities, edit)] : []),
    ...(entities.every(({ color }) => color !== null) ? [createColorItem(firstEntity, edit)] : []),
    ...(entities.length === 1 && firstEntity.address !== null ? [createNote("address", texts.address, firstEntity.address)] : []),
    ...(entities.length === 1 && firstEntity.parts.length > 0 ? [createNote("parts", texts.parts, firstEntity.parts.join(", "))] : []),
  ];
}

type EditEntities = (change: (entity: WorldEntity) => Change) => void;

function createNameItem({ name }: WorldEntity, modeling: Modeling): TreeItem {
  const set = (value: PropertyValue): void => {
    const text = String(value).trim();
    if (text !== "" && text !== name) modeling.change([{ name, new_name: text }]);
  };
  return { key: "name", name: strings.modeling.name, kind: "string", value: name, description: "", set };
}

function createPoseItems(entities: readonly WorldEntity[], firstIndex: number, names: readonly string[], scale: number, edit: EditEntities): TreeItem[] {
  return names.map((name, i) => {
    const values = entities.map(({ pose }) => (pose[firstIndex + i] ?? 0) * scale);
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((entity) => ({ name: entity.name, pose: entity.pose.with(firstIndex + i, roundNoise(value / scale)) }));
    };
    return { key: `pose/${firstIndex + i}`, name, kind: "float", value: findCommonValue(values), description: "", set };
  });
}

function createSizeItems(entities: readonly WorldEntity[], edit: EditEntities): TreeItem[] {
  const [firstEntity] = entities;
  const names = firstEntity?.shape ? strings.modeling.lengths[firstEntity.shape] : [];
  return names.map((name, i) => {
    const set = (value: PropertyValue): void => {
      if (typeof value === "number") edit((entity) => createResizeChange(entity, entity.size.with(i, value)));
    };
    return { key: `size/${i}`, name, kind: "float", value: findCommonValue(entities.map(({ size }) => size[i] ?? 0)), description: "", minimum: MIN_SIZE_M, set };
  });
}

function createStaticItem(entities: readonly WorldEntity[], edit: EditEntities): TreeItem {
  const { static: name, staticHint: description } = strings.modeling;
  const isStatic = entities.every((entity) => entity.static);
  return { key: "static", name, kind: "bool", value: isStatic, description, set: (value) => edit((entity) => ({ name: entity.name, static: value === true })) };
}

function createColorItem({ color }: WorldEntity, edit: EditEntities): TreeItem {
  const set = (value: PropertyValue): void => {
    const rgb = parseChannels(String(value));
    edit((entity) => ({ name: entity.name, color: [...rgb, entity.color?.[3] ?? 1] }));
  };
  return { key: "color", name: strings.modeling.color, kind: "color", value: formatHex(color ?? []), description: "", set };
}

/** Returns `#rrggbb` for red, green and blue from 0 to 1. */
export function formatHex(color: readonly number[]): string {
  const formatChannel = (i: number): string => Math.round(Math.max(0, Math.min(1, color[i] ?? 0)) * 255).toString(16).padStart(2, "0");
  return `#${formatChannel(0)}${formatChannel(1)}${formatChannel(2)}`;
}

function parseChannels(text: string): number[] {
  return [1, 3, 5].map((offset) => Math.round((parseInt(text.slice(offset, offset + 2), 16) / 255) * 1e4) / 1e4);
}

function createGroup(key: string, name: string, items: readonly TreeItem[]): TreeItem {
  return { key, name, kind: "group", value: "", description: "", isStrong: true, isExpanded: true, children: () => items };
}

function createNote(key: string, name: string, value = ""): TreeItem {
  return { key, name, kind: "group", value, description: "", isStrong: value === "" };
}

/** Returns the value that all entities share; null if they differ. */
function findCommonValue(values: readonly number[]): number | null {
  const [firstValue = null] = values;
  return values.every((value) => value === firstValue) ? firstValue : null;
}
