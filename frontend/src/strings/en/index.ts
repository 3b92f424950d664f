import { comparison } from "./comparison";
import { description } from "./description";
import { details } from "./details";
import { displays } from "./displays";
import { editing } from "./editing";
import { meshes } from "./meshes";
import { modelling } from "./modelling";
import { monitor } from "./monitor";
import { plural } from "./plural";
import { recording } from "./recording";
import { sharing } from "./sharing";
import { shell } from "./shell";
import { simulation } from "./simulation";
import { timeline } from "./timeline";
import { tools } from "./tools";
import { values } from "./values";
import { voice } from "./voice";

/** Every word of the page that does not come from the server. */
export const en = {
  panels: {
    ...description.panels,
    ...tools.panels,
    ...monitor.panels,
    displays: "Displays",
    scene: "3D View",
    views: "Views",
    joints: "Joints",
    diagnostics: "Diagnostics",
    world: modelling.panel,
    comparison: comparison.panel,
    voice: voice.panel,
    editing: editing.panel,
  },
  shell,
  sharing,
  simulation,
  meshes,
  timeline,
  values,
  recording,
  comparison,
  editing,
  modelling,
  voice,
  details,
  displays,
  tree: {
    globalOptions: "Global Options",
    globalStatus: "Global Status",
    status: "Status",
    levels: { ok: "Ok", loading: "Loading", warn: "Warn", error: "Error" },
    notDrawn: "not drawn",
    notDrawnHelp: "Linkwright keeps this display in the file but does not draw it.",
    enabledHelp: "Switches this display on and off.",
    pickColor: "Pick a colour",
    frames: "Known frames",
    noNames: "None is known.",
  },
  views: tools.views,
  tools: tools.tools,
  selected: tools.selected,
  time: tools.time,
  transformation: tools.transformation,
  keys: tools.keys,
  description,
  joints: {
    randomize: "Randomize",
    randomizeHint: "Move every joint to a random position within its limits",
    center: "Center",
    centerHint: "Move every joint to its zero position",
    radians: "rad",
    degrees: "deg",
    metres: "m",
    unitHint: "Unit of rotating joints",
    filter: "Filter joints",
    follows: (joint: string): string => `follows ${joint}`,
    position: (joint: string): string => `Position of ${joint}`,
    none: "No joints to move.",
  },
  diagnostics: {
    none: "No problems found.",
    hint: "Hint",
    note: "Note",
    lastGood: "The last good robot stays until this is mended.",
    show: "Show",
    close: "Close this message",
    showDisplay: "Show it in the list of displays",
    more: (count: number): string => `and ${count} more`,
  },
  interactive: {
    menu: "Right-click: menu.",
    modes: {
      menu: "Click: menu.",
      button: "Click: activate.",
      move_axis: "Drag: move along the axis.",
      move_plane: "Drag: move in the plane.",
      rotate_axis: "Drag: turn about the axis.",
      move_rotate: "Drag: move and turn.",
      move_3d: "Drag: move. Shift+drag: nearer or farther.",
      rotate_3d: "Drag: turn. Shift+drag: turn about the line of sight.",
      move_rotate_3d: "Drag: move. Shift: nearer or farther. Ctrl: turn. Ctrl+Shift: about the line of sight.",
    },
  },
  selection: {
    title: "Selected link",
    frame: "Frame",
    joint: "Parent joint",
    source: "Source",
    noPlace: "No source position is known.",
    copy: "Copy the place",
    copied: "Copied",
    fold: "Show or hide what is known of the link",
    clear: "Clear the selection (Esc)",
  },
  scene: {
    label: "3D view",
    waiting: "Waiting for a robot description",
    frame: {
      missing: (name: string): string => `The frame '${name}' does not exist`,
      hint: "It is the Fixed Frame: without it nothing has a place. A node may still publish it.",
      use: (name: string): string => `Use ${name}`,
      useWithRobot: (name: string): string => `Use ${name}, and show the robot`,
    },
    arguments: {
      label: "Arguments of the description",
      title: (file: string): string => `${file} needs arguments`,
      known: "These are the values that launch files and tests of its package give.",
      unknown: "No launch file says which values they have.",
      choose: "Values as in",
      show: "Show",
    },
    keys: "3D view. Arrow keys turn it, with Shift they move it, plus and minus zoom, F looks at what is selected, question mark lists all keys.",
    noWebgl: "This browser gives no WebGL 2, which the 3D view needs.",
    noWebglHelp: "Turn on its hardware acceleration, or open the page in another browser. The other panels work without it.",
  },
  connection: {
    connecting: "Connecting",
    connected: "Connected",
    reconnecting: "Connection lost, trying again",
    ended: "The program has ended",
    endedHint: "Start it again in the same way, and this page goes on.",
    refused: "Another program runs here now",
    refusedHint: "Open the address that it printed.",
    outdated: "This page is of another version than the program. Close it and open the program's address anew.",
  },
  door: {
    title: "This page needs its token",
    printed: "Linkwright prints the address of its page, token included, in the terminal where it was started:",
    hint: "Open that address, or paste it here. A page that is open already gives it under Share, Copy link.",
    label: "Address or token",
    open: "Open",
    unknown: "The program does not know this token: each port has another, and a new one after a week.",
    noToken: "There is no token in this text.",
  },
  status: {
    fps: (count: number): string => `${count} fps`,
    idle: "idle",
    fixedFrame: "Fixed frame",
    links: (count: number): string => plural(count, "link"),
    noRobot: "no robot",
    slow: (fps: string): string => `${fps}, slow page`,
    frames: (count: number): string => `${count} frames drawn`,
  },
  monitor,
  close: "Close",
  closeTab: "Close (Delete)",
  suggestions: "Suggestions",
  pictures: {
    none: "No image",
    unreadable: "The image cannot be read",
    noCameraInfo: "No CameraInfo",
  },
};

export type Strings = typeof en;
