// planted-file: twin
int forgotten() { return 1; }
