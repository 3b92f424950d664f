import type { Connection } from "../../connection/connection";
import type { ModelChoice, ModelingState, WorldEntity } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import type { Change, NewKind, Placement } from "./shapes";
import { Snapping } from "./snapping";

/** The mode of the gizmo. */
export type GizmoMode = "translate" | "rotate" | "scale";

/** The entity that the next click in the scene adds; `address` is that of a model. */
export interface Placing {
  readonly kind: NewKind;
  readonly address: string;
}

/** An entity dropped onto the scene: pixels from the window's upper left corner; null for the center of the scene. */
export interface Drop {
  readonly placing: Placing;
  readonly position: { readonly x: number; readonly y: number } | null;
}

const NO_WORLD: Omit<ModelingState, "type"> = {
  available: false,
  active: false,
  file: null,
  unsaved: false,
  can_undo: false,
  can_redo: false,
  entities: [],
};
/** The minimum distance between a copy and its original, m. */
const MIN_COPY_OFFSET_M = 0.5;

/** Modeling of the world: the state of its file from the server, and this page's selection and tool. */
export class Modeling {
  /** The world, or whether it can be edited, changed. */
  readonly changed = new Signal();
  readonly selectionChanged = new Signal();
  /** The mode of the gizmo, or the entity being placed, changed. */
  readonly toolChanged = new Signal();
  /** The models that can be added have arrived. */
  readonly modelsArrived = new Signal<readonly ModelChoice[]>();
  /** An entity was dropped onto the scene; see `takeDrop`. */
  readonly dropped = new Signal();
  readonly snapping: Snapping;
  private world = NO_WORLD;
  private names: readonly string[] = [];
  private gizmoMode: GizmoMode = "translate";
  private chosenPlacing: Placing | null = null;
  private lastDrop: Drop | null = null;
  private clipboard: readonly string[] = [];
  /** Whether this page added entities, so that the new ones of the next state are to be selected. */
  private selectsNew = false;

  constructor(
    private readonly connection: Connection,
    storage: TextStorage,
  ) {
    this.snapping = new Snapping(storage);
    connection.on("modeling_state", (state) => this.setState(state));
    connection.on("model_choices", ({ models }) => this.modelsArrived.emit(models));
    connection.on("simulation_notice", () => (this.selectsNew = false));
  }

  /** Whether there is a world that can be edited. */
  get isAvailable(): boolean {
    return this.world.available;
  }

  get isActive(): boolean {
    return this.world.active;
  }

  /** The file of the world; null if it was never saved. */
  get file(): string | null {
    return this.world.file;
  }

  get isUnsaved(): boolean {
    return this.world.unsaved;
  }

  get canUndo(): boolean {
    return this.world.can_undo;
  }

  get canRedo(): boolean {
    return this.world.can_redo;
  }

  get entities(): readonly WorldEntity[] {
    return this.world.entities;
  }

  /** The names of the selected entities, in the order of selection. */
  get selectedNames(): readonly string[] {
    return this.names;
  }

  get selectedEntities(): WorldEntity[] {
    return this.names.flatMap((name) => this.find(name) ?? []);
  }

  get gizmo(): GizmoMode {
    return this.gizmoMode;
  }

  set gizmo(mode: GizmoMode) {
    if (mode === this.gizmoMode) return;
    this.gizmoMode = mode;
    this.toolChanged.emit();
  }

  get placing(): Placing | null {
    return this.chosenPlacing;
  }

  /** Whether the selection can be grouped into one model. */
  get canGroup(): boolean {
    const entities = this.selectedEntities;
    return entities.length > 1 && entities.every(({ kind }) => kind === "model");
  }

  get canUngroup(): boolean {
    return this.selectedEntities.some(({ parts }) => parts.length > 0);
  }

  get canScale(): boolean {
    const [entity, ...otherEntities] = this.selectedEntities;
    return otherEntities.length === 0 && entity !== undefined && entity.shape !== null;
  }

  find(name: string): WorldEntity | null {
    return this.world.entities.find((entity) => entity.name === name) ?? null;
  }

  /** Selects entities; `toggle` adds unselected ones and removes selected ones. */
  select(names: readonly string[], mode: "replace" | "toggle" = "replace"): void {
    const otherNames = this.names.filter((name) => !names.includes(name));
    const addedNames = names.filter((name) => !this.names.includes(name));
    this.setSelection(mode === "replace" ? names : [...otherNames, ...addedNames]);
  }

  /** Chooses the entity that the next click in the scene adds; null for none. */
  startPlacing(placing: Placing | null): void {
    this.chosenPlacing = placing;
    this.toolChanged.emit();
  }

  /** Drops an entity onto the scene. */
  drop(drop: Drop): void {
    this.lastDrop = drop;
    this.dropped.emit();
  }

  /** Returns the last drop once; the scene may load only after the drop. */
  takeDrop(): Drop | null {
    const drop = this.lastDrop;
    this.lastDrop = null;
    return drop;
  }

  setActive(isActive: boolean): void {
    this.connection.send({ type: "set_modeling", active: isActive });
  }

  add({ kind, address }: Placing, { pose, size }: Placement): void {
    this.selectsNew = true;
    this.connection.send({ type: "add_entity", shape: kind, address, pose: [...pose], size: [...size] });
  }

  /** Applies changes as one step of undo. */
  change(changes: readonly Change[]): void {
    if (changes.length === 0) return;
    if (changes.some(({ new_name }) => typeof new_name === "string")) this.selectsNew = true;
    const unchangedFields = { pose: null, size: null, new_name: null, static: null, color: null };
    this.connection.send({ type: "change_entities", changes: changes.map((change) => ({ ...unchangedFields, ...change })) });
  }

  copy(): void {
    this.clipboard = this.names;
  }

  paste(): void {
    this.sendCopies(this.clipboard.filter((name) => this.find(name)));
  }

  duplicate(): void {
    this.sendCopies(this.names);
  }

  remove(): void {
    if (this.names.length > 0) this.connection.send({ type: "delete_entities", names: [...this.names] });
  }

  groupSelected(): void {
    if (!this.canGroup) return;
    this.selectsNew = true;
    this.connection.send({ type: "group_entities", names: [...this.names], name: "group" });
  }

  ungroupSelected(): void {
    for (const { name, parts } of this.selectedEntities) {
      if (parts.length === 0) continue;
      this.selectsNew = true;
      this.connection.send({ type: "ungroup_entity", name });
    }
  }

  undo(): void {
    if (this.canUndo) this.connection.send({ type: "undo_world" });
  }

  redo(): void {
    if (this.canRedo) this.connection.send({ type: "redo_world" });
  }

  /** Saves the world to its file, or to `path`. */
  save(path: string | null): void {
    this.connection.send({ type: "save_world", path });
  }

  requestModels(): void {
    this.connection.send({ type: "request_models" });
  }

  private sendCopies(names: readonly string[]): void {
    if (names.length === 0) return;
    this.selectsNew = true;
    const offset = Math.max(MIN_COPY_OFFSET_M, this.snapping.meters);
    this.connection.send({ type: "copy_entities", names: [...names], offset: [offset, offset, 0] });
  }

  private setState(state: ModelingState): void {
    const previousNames = new Set(this.world.entities.map(({ name }) => name));
    this.world = state;
    const newNames = state.entities.map(({ name }) => name).filter((name) => !previousNames.has(name));
    const remainingNames = state.active ? this.names.filter((name) => this.find(name)) : [];
    if (!state.active && this.chosenPlacing) this.startPlacing(null);
    this.changed.emit();
    if (this.selectsNew && newNames.length > 0) {
      this.selectsNew = false;
      this.setSelection(newNames);
    } else if (remainingNames.length < this.names.length) this.setSelection(remainingNames);
  }

  private setSelection(names: readonly string[]): void {
    if (names.length === this.names.length && names.every((name, i) => name === this.names[i])) return;
    this.names = names;
    this.selectionChanged.emit();
  }
}
