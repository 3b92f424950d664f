import type { ServerMessage } from "../protocol";

/** The server's messages at the time of the export, as `panels/export/html.py` writes them. */
export interface Recording {
  /** The name and version of the program. */
  program: string;
  /** The RobotModel display whose joints can be moved. */
  display: string;
  /**
   * Whether the page must fit the grid and the axes to the size of the robot: the configuration sets no size, and the
   * robot had not been drawn.
   */
  awaits_size: boolean;
  /** The typical distance of a link's frame from its parent's, m; null if unknown. */
  spacing: number | null;
  messages: ServerMessage[];
  /** Binary frames, base64. */
  frames: string[];
  /** Meshes and textures by the path of their address, base64. */
  files: Record<string, string>;
}

export function readRecording(element: HTMLElement): Recording {
  return JSON.parse(element.textContent) as Recording;
}

export function decodeBase64(base64: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}
