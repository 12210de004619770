// The search takes a word with a leading dash as one that must be absent. Here it is an option: -wear_rtol, or
// --fretting-log, of which the index has the two words: both must be present.
const QUERY = 2; // type of the message that asks Material's search worker
const post = Worker.prototype.postMessage;

function wordsOf(option) {
  const words = option.split("-").filter(Boolean);
  return words.length > 1 ? words.map((word) => "+" + word).join(" ") : words.join();
}

Worker.prototype.postMessage = function (message, ...rest) {
  const asks = message?.type === QUERY && typeof message.data === "string";
  const query = asks && message.data.replace(/(^|\s)-+(\w[\w-]*)/g, (_, space, option) => space + wordsOf(option));
  return post.call(this, asks ? { ...message, data: query } : message, ...rest);
};

// The search reads the field when a key is released; a word pasted by mouse or on a phone releases none.
document.querySelector("[data-md-component=search-query]")?.addEventListener("input", (event) => {
  event.target.dispatchEvent(new Event("keyup", { bubbles: true }));
});
