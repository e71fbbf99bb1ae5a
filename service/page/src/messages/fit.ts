// A picture being measured, and how that ends without a result.
export const fit = {
  queued: "Waiting for its turn",
  running: (share: string) => `Measuring: ${share}`,
  progress: "Progress",
  cutOff: "There is no connection. The service goes on; you see the result when the connection is back.",
  gone: "This result is gone",
  notShown: "This result cannot be shown",
  another: "Choose another picture",
  change: "Adjust and try again",
  endings: { failed: "No body was found", canceled: "Canceled", timed_out: "It took too long" },
  onlyPicture: "Your photo",
  picture: (number: number) => `Picture ${number}`,
  cancel: "Cancel",
  stopping: "Stopping …",
  forget: "Remove from the history",
} as const;
