// A fit on its way, and how one ends without a result.
export const fit = {
  queued: "Waiting for its turn",
  running: "Fitting the body",
  progress: "Progress of the fit",
  cutOff: "There is no connection. The service goes on; you see the result when the connection is back.",
  gone: "This fit is gone",
  notShown: "This fit cannot be shown",
  another: "Start another",
  change: "Change something and try again",
  endings: { failed: "No body was found", canceled: "The fit was canceled", timed_out: "The fit took too long" },
  onlyPicture: "The picture of this fit",
  picture: (number: number) => `Picture ${number}`,
  cancel: "Cancel",
  stopping: "Stopping …",
  forget: "Forget it here",
} as const;
