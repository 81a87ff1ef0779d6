// The book's search, on search.html: mkdocs' index and lunr in the page itself, so that it works from a file as well as
// from a server. Every word must be there, as it is or as the beginning of a longer one.
"use strict";

(function () {
  const list = document.getElementById("mkdocs-search-results");
  const box = document.getElementById("mkdocs-search-query");
  if (!list || !box) return;

  function load(name, then) {
    const script = document.createElement("script");
    script.src = base_url + "/search/" + name;
    script.onload = then;
    document.body.appendChild(script);
  }

  function indexed() {
    lunr.tokenizer.separator = new RegExp(searchIndex.config.separator);
    return lunr(function () {
      this.ref("location");
      this.field("title", { boost: 10 });
      this.field("text");
      searchIndex.docs.forEach((each) => this.add(each));
    });
  }

  function found(index, words) {
    return index.query((query) => {
      lunr.tokenizer(words).forEach((token) => {
        const word = token.toString();
        const stem = index.pipeline.runString(word)[0] || word;
        const required = lunr.Query.presence.REQUIRED;
        query.term([stem], { usePipeline: false, wildcard: lunr.Query.wildcard.TRAILING, presence: required });
      });
    });
  }

  function show(index) {
    const about = new Map(searchIndex.docs.map((each) => [each.location, each]));
    list.replaceChildren();
    const words = box.value.trim();
    if (!words) return;
    const hits = found(index, words);
    for (const hit of hits.slice(0, 40)) {
      const each = about.get(hit.ref);
      const page = about.get(hit.ref.split("#")[0]);
      const link = document.createElement("a");
      link.href = base_url + "/" + each.location;
      link.textContent = page && page !== each ? page.title + ": " + each.title : each.title;
      const head = document.createElement("h3");
      head.appendChild(link);
      const text = document.createElement("p");
      text.textContent = each.text.slice(0, 200);
      list.append(head, text);
    }
    if (!hits.length) list.textContent = list.dataset.noResultsText || "Nothing found";
  }

  load("lunr.js", () =>
    load("search_index.js", () => {
      const index = indexed();
      box.value = new URLSearchParams(window.location.search).get("q") || "";
      box.addEventListener("input", () => show(index));
      show(index);
    }),
  );
})();
