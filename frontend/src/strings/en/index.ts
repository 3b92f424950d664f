import { comparison } from "./comparison";
import { description } from "./description";
import { details } from "./details";
import { displays } from "./displays";
import { editing } from "./editing";
import { sourceEditor } from "./source-editor";
import { learning } from "./learning";
import { meshes } from "./meshes";
import { modeling } from "./modeling";
import { monitor } from "./monitor";
import { motionPlanning } from "./motion-planning";
import { plural } from "./plural";
import { recording } from "./recording";
import { sharing } from "./sharing";
import { shell } from "./shell";
import { simulation } from "./simulation";
import { terminal } from "./terminal";
import { timeline } from "./timeline";
import { tools } from "./tools";
import { turtlesim } from "./turtlesim";
import { values } from "./values";
import { voice } from "./voice";

/** All texts of the page that do not come from the server. */
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
    world: modeling.panel,
    comparison: comparison.panel,
    voice: voice.panel,
    editing: editing.panel,
    terminal: terminal.panel,
    program: terminal.program,
    lesson: learning.lesson,
    checks: learning.checks,
    "motion-planning": motionPlanning.panel,
    turtlesim: turtlesim.panel,
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
  sourceEditor,
  modeling,
  motionPlanning,
  voice,
  terminal,
  turtlesim,
  learning,
  details,
  displays,
  tree: {
    globalOptions: "Global Options",
    globalStatus: "Global Status",
    status: "Status",
    levels: { ok: "Ok", loading: "Loading", warn: "Warn", error: "Error" },
    notDrawn: "not drawn",
    notDrawnHelp: "Linkwright keeps this display in the file, but cannot draw it.",
    enabledHelp: "Enable or disable this display.",
    pickColor: "Pick a color",
    frames: "Known frames",
    noNames: "No names are known.",
  },
  views: tools.views,
  tools: tools.tools,
  selected: tools.selected,
  time: tools.time,
  transformation: tools.transformation,
  help: tools.help,
  visualTools: tools.visualTools,
  keys: tools.keys,
  description,
  joints: {
    randomize: "Randomize",
    randomizeHint: "Move all joints to random positions within their limits",
    center: "Center",
    centerHint: "Move all joints to their zero positions",
    radians: "rad",
    degrees: "deg",
    meters: "m",
    unitHint: "Unit of revolute joints",
    filter: "Filter joints",
    follows: (joint: string): string => `follows ${joint}`,
    position: (joint: string): string => `Position of ${joint}`,
    none: "No joints to move.",
  },
  diagnostics: {
    none: "No problems found.",
    hint: "Hint",
    note: "Note",
    withoutImages: "Switch off images",
    lastGood: "The last valid robot remains until this is fixed.",
    show: "Show",
    close: "Close this message",
    showDisplay: "Show it in the Displays panel",
    more: (count: number): string => `and ${count} more`,
  },
  interactive: {
    menu: "Right-click: menu.",
    modes: {
      menu: "Click: menu.",
      button: "Click: activate.",
      move_axis: "Drag: move along the axis.",
      move_plane: "Drag: move in the plane.",
      rotate_axis: "Drag: rotate about the axis.",
      move_rotate: "Drag: move and rotate.",
      move_3d: "Drag: move. Shift+drag: move nearer or farther.",
      rotate_3d: "Drag: rotate. Shift+drag: rotate about the line of sight.",
      move_rotate_3d: "Drag: move. Shift: nearer or farther. Ctrl: rotate. Ctrl+Shift: rotate about the line of sight.",
    },
  },
  selection: {
    title: "Selected link",
    frame: "Frame",
    joint: "Parent joint",
    source: "Source",
    noPlace: "The source position is not known.",
    copy: "Copy the position",
    copied: "Copied",
    fold: "Show or hide the details of the link",
    clear: "Clear the selection (Esc)",
  },
  scene: {
    label: "3D view",
    waiting: "Waiting for a robot description",
    frame: {
      missing: (name: string): string => `The frame '${name}' does not exist`,
      hint: "It is the Fixed Frame, in which everything is drawn. A node may still publish it.",
      use: (name: string): string => `Use ${name}`,
      useWithRobot: (name: string): string => `Use ${name}, and show the robot`,
    },
    arguments: {
      label: "Arguments of the description",
      title: (file: string): string => `${file} needs arguments`,
      known: "These values come from launch files and tests of its package.",
      unknown: "No launch file sets their values.",
      choose: "Values as in",
      show: "Show",
    },
    keys: "3D view. Arrow keys rotate the view, Shift and arrow keys move it, plus and minus zoom, F focuses on the selection, question mark lists all keys.",
    noWebgl: "The 3D view needs WebGL 2, which this browser does not provide.",
    noWebglHelp: "Turn on hardware acceleration, or open the page in another browser. The other panels work without it.",
  },
  connection: {
    connecting: "Connecting",
    connected: "Connected",
    reconnecting: "Connection lost, trying again",
    ended: "The program has ended",
    endedHint: "Start it again in the same way, and this page reconnects.",
    refused: "Another program is running at this address now",
    refusedHint: "Open the address that it printed.",
    outdated: "This page and the program have different versions. Close the page and open the program's address again.",
  },
  door: {
    title: "This page needs its token",
    printed: "Linkwright prints the address of its page, with the token, in the terminal where it was started:",
    hint: "Open that address, or paste it here. In a page that is already open, Share, Copy link copies it.",
    label: "Address or token",
    open: "Open",
    unknown: "This token is not valid: each port has its own, which changes after a week.",
    noToken: "This text contains no token.",
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
  images: {
    none: "No image",
    unreadable: "The image cannot be read",
    noCameraInfo: "No CameraInfo",
  },
};

export type Strings = typeof en;
