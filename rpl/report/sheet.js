// Ticks of the checklist stay in this browser; where it keeps nothing they hold until the page is closed.
(function () {
  var name = "rpl-checklist-" + document.body.dataset.identity;
  var boxes = Array.from(document.querySelectorAll(".checklist input"));
  var keys = boxes.map(function (box) {
    var section = box.closest("ul").previousElementSibling.previousElementSibling.textContent;
    return section + "\n" + box.closest("li").textContent;
  });
  var ticked = {};
  try {
    ticked = JSON.parse(localStorage.getItem(name)) || {};
  } catch (error) {
    ticked = {};
  }
  function show(box) {
    box.closest("li").classList.toggle("done", box.checked);
  }
  boxes.forEach(function (box, at) {
    box.checked = ticked[keys[at]] === true;
    show(box);
    box.addEventListener("change", function () {
      ticked[keys[at]] = box.checked;
      show(box);
      try {
        localStorage.setItem(name, JSON.stringify(ticked));
      } catch (error) {
        return;
      }
    });
  });
  window.addEventListener("beforeprint", function () {
    document.querySelectorAll("details").forEach(function (one) { one.open = true; });
  });
})();
