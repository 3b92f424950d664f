interface ReducedImage {
  columns: number;
  rows: number;
  width: number;
  height: number;
  quality: number;
}

/** Export, screenshots, videos, and the notice about reduced data on a slow connection. */
export const sharing = {
  slow: {
    line: "The connection is slow",
    page: "This computer draws too slowly",
    program: "The computer that runs Linkwright is busy",
  },
  slowHints: {
    line: "Robot motion has priority; other data has less detail. A cable or fewer displays help.",
    page: "Fewer or simpler displays, a smaller window, or a graphics card help.",
    program: "The connection is not the cause. Fewer programs, sensors or displays help.",
  },
  plainLight: "With the light set to Automatic, a soft light at the camera replaces the slower studio light.",
  software: (name: string): string => `The browser draws without a graphics card (${name}).`,
  points: (step: number): string => `1 in ${step} points`,
  image: ({ columns, rows, width, height, quality }: ReducedImage): string =>
    `WebP ${columns} × ${rows} of ${width} × ${height}, quality ${quality}`,
  share: "Share",
  copyLink: "Copy link",
  copyLinkHint: "The address with its token: anyone who opens it can see and move the robot",
  linkCopied: "Link copied",
  linkHere: "Copy this link",
  screenshot: "Screenshot",
  screenshotScaled: (scale: number): string => `Screenshot, ${scale} times as large`,
  startVideo: "Record a video",
  stopVideo: (time: string): string => `Stop recording (${time})`,
  recording: "Recording",
  exportHtml: "Export HTML…",
  exportGlb: "Export glb…",
  exportFailed: "The robot could not be exported",
  exportOutside: "The export contains files from outside the packages",
  exportOutsideHint: "The exported file contains the contents of these files. Check that you may publish them before you share it.",
  exported: {
    made: (program: string): string => `Made with ${program}`,
    joints: "Joints",
    views: "View",
    shown: "Shown",
    visual: "Visual",
    collision: "Collision",
    start: "Reset",
    startHint: "Reset the joints and the view to those in the file",
    sides: { start: "Start", front: "Front", left: "Left", top: "Top", iso: "Corner" },
    sidebar: "Panel",
  },
};
