import { Signal } from "../signal";
import type { TextStorage } from "../storage";

/** Named joint positions, rad or m. */
export interface NamedPose {
  readonly name: string;
  readonly positions: Readonly<Record<string, number>>;
}

const STORAGE_KEY_PREFIX = "linkwright.poses.";

/**
 * The named poses of each robot, by the robot's name. The browser stores them; a file transfers them to another
 * browser.
 */
export class PoseStore {
  readonly changed = new Signal();

  constructor(private readonly storage: TextStorage) {}

  posesOf(robot: string): readonly NamedPose[] {
    try {
      const poses: unknown = JSON.parse(this.storage.getItem(STORAGE_KEY_PREFIX + robot) ?? "[]");
      return Array.isArray(poses) ? poses.filter(isPose) : [];
    } catch {
      return [];
    }
  }

  /** Stores poses, replacing those with the same name. */
  save(robot: string, ...poses: readonly NamedPose[]): void {
    const posesByName = new Map([...this.posesOf(robot), ...poses].map((pose) => [pose.name, pose]));
    this.write(robot, [...posesByName.values()]);
  }

  remove(robot: string, name: string): void {
    this.write(robot, this.posesOf(robot).filter((pose) => pose.name !== name));
  }

  private write(robot: string, poses: readonly NamedPose[]): void {
    this.storage.setItem(STORAGE_KEY_PREFIX + robot, JSON.stringify(poses));
    this.changed.emit();
  }
}

/** Returns poses as group states of an SRDF file, which MoveIt reads, too. */
export function formatSrdf(robot: string, poses: readonly NamedPose[]): string {
  const states = poses.map(({ name, positions }) => {
    const joints = Object.entries(positions).map(
      ([joint, value]) => `    <joint name="${escapeXml(joint)}" value="${String(value)}"/>`,
    );
    return [`  <group_state name="${escapeXml(name)}" group="all">`, ...joints, "  </group_state>"].join("\n");
  });
  return ['<?xml version="1.0"?>', `<robot name="${escapeXml(robot)}">`, ...states, "</robot>", ""].join("\n");
}

/**
 * Returns the group states of an SRDF file. States of several groups with the same name become several poses; joints
 * with several values are omitted.
 */
export function parseSrdf(srdf: string): NamedPose[] {
  const text = srdf.replace(/<!--[\s\S]*?-->/g, "");
  const poses = new Map<string, NamedPose>();
  for (const [, groupAttributes = "", content = ""] of text.matchAll(/<group_state\b([^>]*)>([\s\S]*?)<\/group_state\s*>/g)) {
    const positions: Record<string, number> = {};
    for (const [, jointAttributes = ""] of content.matchAll(/<joint\b([^>]*)>/g)) {
      const [name, value] = [readAttribute(jointAttributes, "name"), readAttribute(jointAttributes, "value")];
      if (name !== null && value !== null && value !== "" && Number.isFinite(Number(value))) positions[name] = Number(value);
    }
    const poseName = readAttribute(groupAttributes, "name") ?? "";
    const name = poses.has(poseName) ? `${poseName} (${readAttribute(groupAttributes, "group") ?? ""})` : poseName;
    if (name !== "" && Object.keys(positions).length > 0) poses.set(name, { name, positions });
  }
  return [...poses.values()];
}

/** Whether the joints are at the positions of a pose, as far as it sets them. */
export function matchesPose(pose: NamedPose, positions: Readonly<Record<string, number>>): boolean {
  return Object.entries(pose.positions).every(([name, value]) => {
    const position = positions[name];
    return position === undefined || Math.abs(position - value) < 1e-6;
  });
}

function isPose(value: unknown): value is NamedPose {
  const pose = value as Partial<NamedPose> | null;
  return typeof pose?.name === "string" && typeof pose.positions === "object";
}

function readAttribute(tag: string, name: string): string | null {
  const match = new RegExp(`(?:^|\\s)${name}\\s*=\\s*(?:"([^"]*)"|'([^']*)')`).exec(tag);
  const value = match && (match[1] ?? match[2]);
  return value === null || value === undefined ? null : unescapeXml(value).trim();
}

const XML_ENTITIES: Readonly<Record<string, string>> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };

function escapeXml(text: string): string {
  return text.replace(/[&<>"]/g, (character) => XML_ENTITIES[character] ?? character);
}

function unescapeXml(text: string): string {
  return Object.entries(XML_ENTITIES).reduceRight((unescaped, [character, entity]) => unescaped.replaceAll(entity, character), text);
}
