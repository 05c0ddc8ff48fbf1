// The hbar command when the world does not play along: files, interrupts, memory, Newton.

#include <sys/stat.h>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using Failures = ToolTest;

TEST_F(Failures, FilesThatCannotBeReadExitWithSix) {
  const Outcome missing = hbar({"info", path("missing.xml")});
  EXPECT_EQ(missing.code, 6);
  EXPECT_EQ(missing.err.find("hbar: " + path("missing.xml")), 0U) << missing.err;
  const Outcome folder = hbar({"info", folder_});
  EXPECT_EQ(folder.code, 6) << folder.err;
  const Outcome controls =
      hbar({"simulate", scene("arm"), "--steps", "2", "--controls", path("u.csv")});
  EXPECT_EQ(controls.code, 6) << controls.err;
}

TEST_F(Failures, OutputsThatCannotBeWrittenExitWithSix) {
  for (const std::string& output :
       {path("no_folder/result.json"), folder_.string(), std::string("/dev/full"),
        std::string("/proc/hbar_result.json")}) {
    for (const char* option : {"--out", "--csv"}) {
      // From the test's folder, since what cannot be written is rescued beside the caller.
      Program program(folder_, {"/bin/sh", "-c",
                                "cd " + folder_.string() + "; exec " HBAR_TOOL " simulate " +
                                    scene("pendulum") + " --steps 2 " + option + ' ' + output});
      EXPECT_EQ(program.wait(), 6) << output;
      EXPECT_EQ(program.err().find("hbar: " + output), 0U) << program.err();
    }
  }
  EXPECT_EQ(hbar({"simulate", scene("pendulum")}, "/dev/full").code, 6);
  EXPECT_EQ(hbar({"simulate", scene("pendulum"), "--out", "-"}, "/dev/full").code, 6);
}

TEST_F(Failures, InputsAreNeverOverwritten) {
  const std::string text = read_file(scene("arm"));
  const std::string file = write("arm.xml", text);
  const std::string controls = write("u.csv", "1 2 3\n1 2 3\n");
  std::filesystem::create_symlink(file, folder_ / "link.xml");
  for (const std::string& output : {file, path("./arm.xml"), path("link.xml"), controls}) {
    const Outcome outcome =
        hbar({"simulate", file, "--steps", "2", "--controls", controls, "--out", output});
    EXPECT_EQ(outcome.code, 6);
    EXPECT_EQ(outcome.err, "hbar: " + output +
                               ": is an input of this run and stays as it is; name another file "
                               "for the results\n");
  }
  EXPECT_EQ(read_file(file), text);
  EXPECT_EQ(read_file(controls), "1 2 3\n1 2 3\n");
  EXPECT_EQ(hbar({"simulate", file, "--out", path("same"), "--csv", path("same")}).code, 2);
}

TEST_F(Failures, AFailedWriteLeavesTheOldFileAndNoTemporaryOne) {
  const std::string old = write("result.json", "old");
  // No file may grow: every write fails with EFBIG, for root too.
  const std::string command = std::string("trap '' XFSZ; ulimit -f 0; exec ") + HBAR_TOOL +
                              " simulate " + scene("pendulum") + " --out " + old +
                              " >/dev/null 2>&1";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 6);
  EXPECT_EQ(read_file(old), "old");
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) {
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST_F(Failures, AFileThatGrowsTooLargeIsNoCrash) {
  const std::string command = "cd " + folder_.string() + "; ulimit -f 1; exec " + HBAR_TOOL +
                              " simulate " + scene("pendulum") + " --out result.json 2>err";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 6);
  EXPECT_EQ(read_file(path("err")), "hbar: result.json: cannot be written: File too large\n");
}

TEST_F(Failures, WhatCannotBeWrittenInTheEndIsSavedElsewhere) {
  std::filesystem::create_directory(path("out"));
  std::filesystem::create_directory(path("here"));
  Program program(folder_,
                  {"/bin/sh", "-c",
                   "cd " + path("here") + "; exec " + HBAR_TOOL + " simulate " + scene("pendulum") +
                       " --steps 5000000 --out ../out/r.json --csv " + path("out/q.csv")});
  program.interrupt(0);
  std::filesystem::remove_all(path("out"));
  program.kill(SIGTERM);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_NE(program.err().find("hbar: ../out/r.json: cannot be written: No such file or directory; "
                               "saved as ./r.json.rescued instead\n"),
            std::string::npos)
      << program.err();
  EXPECT_EQ(result("here/r.json.rescued").at("status"), "interrupted");
  EXPECT_FALSE(read_file(path("here/q.csv.rescued")).empty());
}

TEST_F(Failures, OneFileForTwoResultsIsRefusedWhateverItIsCalled) {
  std::filesystem::create_symlink(folder_, folder_ / "link");
  for (const std::string& other : {std::string("./x"), std::string("link/x"), path("x")}) {
    const std::string command = "cd " + folder_.string() + "; exec " + HBAR_TOOL + " simulate " +
                                scene("pendulum") + " --out x --csv " + other + " 2>err";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2) << other;
    EXPECT_EQ(read_file(path("err")), "hbar: --out and --csv name the same file\n");
  }
}

TEST_F(Failures, ASmallStackIsEnough) {
  for (const std::string& command :
       {std::string("--help"), "info " + scene("walker"), "simulate " + scene("walker"),
        "gradient " + scene("walker") + " --params all --steps 5",
        "check " + scene("double_pendulum") + " --q0 '0.5 -0.2' --params all --steps 5"}) {
    EXPECT_EQ(with_small_stack(command), 0) << command << read_file(path("err"));
  }
}

TEST_F(Failures, AReaderThatHasGoneIsNoCrash) {
  const std::string command = std::string("exec 2>") + path("err") + "; { " + HBAR_TOOL + " info " +
                              scene("arm") + "; echo $? > " + path("code") + "; } | true";
  EXPECT_EQ(std::system(command.c_str()), 0);
  const std::string code = read_file(path("code"));
  EXPECT_TRUE(code == "6\n" || code == "0\n") << code;  // 0: written before the reader went
  EXPECT_EQ(read_file(path("err")), "");
  const std::string closed =
      std::string(HBAR_TOOL) + " info " + scene("arm") + " >&- 2>" + path("err");
  EXPECT_EQ(WEXITSTATUS(std::system(closed.c_str())), 6);
  EXPECT_EQ(read_file(path("err")).find("hbar: standard output: cannot be written"), 0U);
}

TEST_F(Failures, ASignalToEndKeepsWhatWasReached) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Program program(folder_, words({"simulate", scene("pendulum"), "--steps", "5000000", "--q0",
                                    "1", "--out", path("result.json"), "--csv", path("q.csv")}));
    program.interrupt(signal);
    EXPECT_EQ(program.wait(), 130);
    EXPECT_EQ(program.err().find("hbar: simulation interrupted after "), 0U) << program.err();
    const nlohmann::json r = result("result.json");
    EXPECT_EQ(r.at("status"), "interrupted");
    const std::size_t done = r.at("steps_done");
    EXPECT_LT(done, 5000000U);
    EXPECT_EQ(r.at("q").size(), done + 1);
    EXPECT_EQ(r.at("newton_iterations").size(), done);
    EXPECT_FALSE(r.contains("objective"));
    EXPECT_EQ(r.at("steps"), 5000000);
    EXPECT_TRUE(std::filesystem::remove(folder_ / "q.csv"));
  }
}

TEST_F(Failures, ASignalBeforeThereIsAnythingToSaveEndsAtOnce) {
  ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);  // reading it waits for ever
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program(folder_, words({"simulate", scene("arm"), "--controls", path("fifo")}));
    program.interrupt_early(signal);
    EXPECT_EQ(program.wait(), 130);
    EXPECT_EQ(program.err(), "");
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Failures, MemoryThatDoesNotSufficeExitsWithSeven) {
  constexpr rlim_t kBytes = 200'000'000;
  Program program(folder_, words({"simulate", scene("pendulum"), "--steps", "20000000"}), "",
                  kBytes);
  EXPECT_EQ(program.wait(), 7);
  EXPECT_EQ(program.err(), "hbar: out of memory; take fewer steps or parameters\n");
}
#endif

TEST_F(Failures, ASimulationThatStopsIsWrittenAndExitsWithFour) {
  std::string text = read_file(scene("double_pendulum"));
  text.insert(text.find("<robot>"), "<solver_option max_iter=\"1\" max_ls=\"1\"/>\n");
  text.replace(text.find("0 0 -9.81"), 9, "0 0 -1e14");
  const std::string file = write("wild.xml", text);
  const Outcome outcome =
      hbar({"gradient", file, "--q0", "1 1", "--dt", "0.5", "--out", path("result.json")});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_EQ(outcome.err.find("hbar: simulation stopped at step "), 0U) << outcome.err;
  const nlohmann::json r = result("result.json");
  EXPECT_EQ(r.at("status"), "step_failed");
  EXPECT_EQ("hbar: " + r.at("message").get<std::string>() + "\n", outcome.err);
  EXPECT_EQ(r.at("q").size(), r.at("steps_done").get<std::size_t>() + 1);
  EXPECT_FALSE(r.contains("gradient"));
}

}  // namespace
}  // namespace hbar::tool
