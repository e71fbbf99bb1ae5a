// The page for developers.
export const trying = {
  title: "Try the API",
  sample: "Send the sample",
  choose: "Choose or drop a picture",
  request: (picture: string) => `JSON for ${picture}`,
  as: "Request as",
  languages: { curl: "curl", fetch: "fetch", python: "Python" },
  send: "Send",
  copy: (what: string) => `Copy: ${what}`,
  copied: "Copied.",
  response: "Response",
  answered: "The service has answered.",
  body: "Body",
  reference: "All operations",
} as const;
