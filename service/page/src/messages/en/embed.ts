// The page in a frame of another site, before that site says whom to measure.
export const embed = {
  waiting: "Just a moment …",
  alone: "This page is made to be shown by other sites. To measure somebody, open the service's own page.",
} as const;
