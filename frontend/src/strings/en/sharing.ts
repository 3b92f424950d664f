interface ReducedImage {
  columns: number;
  rows: number;
  width: number;
  height: number;
  quality: number;
}

/** Export, pictures, videos; and what a slow line leaves out. */
export const sharing = {
  slow: {
    line: "The connection is slow",
    page: "This computer draws too slowly",
    program: "The computer that runs Linkwright is busy",
  },
  slowHints: {
    line: "The robot's movements go first, the rest comes in less detail. A cable or fewer displays help.",
    page: "Fewer or simpler displays, a smaller window or a graphics card help.",
    program: "The connection is not the cause. Fewer programs, sensors or displays help.",
  },
  plainLight: "Where the light is Automatic, it is a soft one at the camera: a studio would be slower.",
  software: (name: string): string => `The browser draws without a graphics card (${name}).`,
  points: (step: number): string => `1 in ${step} points`,
  image: ({ columns, rows, width, height, quality }: ReducedImage): string =>
    `WebP ${columns} × ${rows} of ${width} × ${height}, quality ${quality}`,
  share: "Share",
  copyLink: "Copy link",
  copyLinkHint: "The address with the token: who opens it sees the robot and moves it",
  linkCopied: "The link is on the clipboard",
  linkHere: "Copy this link",
  screenshot: "Screenshot",
  screenshotScaled: (scale: number): string => `Screenshot, ${scale} times as large`,
  startVideo: "Record a video",
  stopVideo: (time: string): string => `Stop recording (${time})`,
  recording: "Recording",
  exportHtml: "Export HTML…",
  exportGlb: "Export glb…",
  exportFailed: "The robot could not be exported",
  exportOutside: "Files outside the packages are in it",
  exportOutsideHint: "The exported file has in it what these files say. Look whether everybody may see that before you give it away.",
  exported: {
    made: (program: string): string => `Made with ${program}`,
    joints: "Joints",
    views: "View",
    shown: "Shown",
    visual: "Visual",
    collision: "Collision",
    start: "Reset",
    startHint: "Joints and view as they were in the file",
    sides: { start: "Start", front: "Front", left: "Left", top: "Top", iso: "Corner" },
    sidebar: "Panel",
  },
};
